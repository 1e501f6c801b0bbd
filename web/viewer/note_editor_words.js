// SPDX-License-Identifier: Apache-2.0
// What the editor of notes says, by language. It is fetched with the editor alone.
export const EDITOR_WORDS = {
  de: {
    'Notes': 'Notizen', 'Place a note': 'Notiz setzen', 'Click on the object': 'Auf das Objekt klicken', 'There is nothing here.': 'Hier ist nichts.',
    'Title': 'Titel', 'Text': 'Text', 'Turn to this view': 'Auf diese Ansicht drehen', 'Delete': 'Löschen',
    'Add this view to the tour': 'Ansicht in die Führung', 'Empty the tour': 'Führung leeren', 'Save': 'Speichern', 'New note': 'Neue Notiz',
  },
  fr: {
    'Notes': 'Notes', 'Place a note': 'Placer une note', 'Click on the object': 'Cliquez sur l’objet', 'There is nothing here.': 'Il n’y a rien ici.',
    'Title': 'Titre', 'Text': 'Texte', 'Turn to this view': 'Tourner vers cette vue', 'Delete': 'Supprimer',
    'Add this view to the tour': 'Ajouter cette vue à la visite', 'Empty the tour': 'Vider la visite', 'Save': 'Enregistrer', 'New note': 'Nouvelle note',
  },
  es: {
    'Notes': 'Notas', 'Place a note': 'Colocar una nota', 'Click on the object': 'Haga clic en el objeto', 'There is nothing here.': 'Aquí no hay nada.',
    'Title': 'Título', 'Text': 'Texto', 'Turn to this view': 'Girar a esta vista', 'Delete': 'Eliminar',
    'Add this view to the tour': 'Añadir esta vista al recorrido', 'Empty the tour': 'Vaciar el recorrido', 'Save': 'Guardar', 'New note': 'Nota nueva',
  },
  ja: {
    'Notes': 'メモ', 'Place a note': 'メモを置く', 'Click on the object': '対象をクリックしてください', 'There is nothing here.': 'ここには何もありません。',
    'Title': '見出し', 'Text': '本文', 'Turn to this view': 'この視点に向ける', 'Delete': '削除',
    'Add this view to the tour': 'この視点をツアーに加える', 'Empty the tour': 'ツアーを空にする', 'Save': '保存', 'New note': '新しいメモ',
  },
  zh: {
    'Notes': '注释', 'Place a note': '放置注释', 'Click on the object': '请点击物体', 'There is nothing here.': '这里没有物体。',
    'Title': '标题', 'Text': '正文', 'Turn to this view': '转到此视角', 'Delete': '删除',
    'Add this view to the tour': '把此视角加入导览', 'Empty the tour': '清空导览', 'Save': '保存', 'New note': '新注释',
  },
};
